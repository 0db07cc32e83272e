/** A file of the repository, deflated, in base64. */
declare module "packed:*" {
  const text: string;
  export default text;
}
